"""Energies of strokes in numpy, apart from the C program: value, analytic gradient, exact Hessian; prints spline_reference.h.
Per Gauss point an energy is psi(r,t,a), r=sum N_k x_k, t=r'=sum N'_k x_k, a=r''=sum N''_k x_k, x=(p0,v0,p1,v1);
grad_k = w(N_k psi_r + N'_k psi_t + N''_k psi_a);  Hess_kl = w sum over {r,t,a}^2 of (basis_k)(basis_l) psi_{..}."""
import numpy as np
A=np.array([[1,1,0,0],[0,1,0,0],[0,0,1,1],[0,0,-1,0]],float)
B=np.array([[0,-1,0],[1,-1,0],[0,1,0],[0,-1,1]],float)
C=np.array([[-1,1],[-2,1],[1,-1],[-1,2]],float)
I2=np.eye(2); EPS=np.array([[0,1.],[-1,0]])
def basis(s):
    u=1-s; return A@np.array([u**3,3*u*u*s,3*u*s*s,s**3]),3*B@np.array([u*u,2*u*s,s*s]),6*C@np.array([u,s])
def gauss(n):
    x,w=np.polynomial.legendre.leggauss(n); return (x+1)/2,w/2
def psi(kind,p,r,t,a):
    """value, first derivatives [r,t,a], second derivatives dict"""
    n=np.hypot(*t);u=t/n;Pn=(I2-np.outer(u,u))/n; z=np.zeros(2);Z=np.zeros((2,2)); H={}
    if kind=='length': return n,[z,u,z],{'tt':Pn}
    if kind=='strain_point':
        S,L0=p['S'],p['L0']; return S*(n-L0)**2/(2*L0),[z,S*(n-L0)/L0*u,z],{'tt':S/L0*(np.outer(u,u)+(n-L0)*Pn)}
    if kind=='bend_kappa':
        Bc=p['B'];c=t[0]*a[1]-t[1]*a[0];al=np.array([a[1],-a[0]]);be=np.array([-t[1],t[0]])
        return Bc*c*c/n**5,[z,2*Bc*c/n**5*al-5*Bc*c*c/n**7*t,2*Bc*c/n**5*be],{
          'tt':2*Bc/n**5*np.outer(al,al)-10*Bc*c/n**7*(np.outer(al,t)+np.outer(t,al))-5*Bc*c*c/n**7*I2+35*Bc*c*c/n**9*np.outer(t,t),
          'ta':2*Bc/n**5*np.outer(al,be)+2*Bc*c/n**5*EPS-10*Bc*c/n**7*np.outer(t,be),'aa':2*Bc/n**5*np.outer(be,be)}
    if kind=='bend_lin':
        k=p['B']/p['L0']**3; return k*a@a,[z,z,2*k*a],{'aa':2*k*I2}
    if kind=='potential':
        c=p['phi'];Q=p['Q'];F=c[0]+c[1]*r[0]+c[2]*r[1]+c[3]*r[0]**2+c[4]*r[0]*r[1]+c[5]*r[1]**2
        g=np.array([c[1]+2*c[3]*r[0]+c[4]*r[1],c[2]+c[4]*r[0]+2*c[5]*r[1]]);Hs=np.array([[2*c[3],c[4]],[c[4],2*c[5]]])
        return Q*F*n,[Q*n*g,Q*F*u,z],{'rr':Q*n*Hs,'rt':Q*np.outer(g,u),'tt':Q*F*Pn}
    if kind=='field':
        c=p['v'];P=p['P'];v=np.array([c[0]+c[1]*r[0]+c[2]*r[1],c[3]+c[4]*r[0]+c[5]*r[1]]);Dv=np.array([[c[1],c[2]],[c[4],c[5]]])
        return P*t@v,[P*Dv.T@t,P*v,z],{'rt':P*Dv.T}
    if kind=='tensor':
        c=p['M'];P=p['P'];m=[q[0]+q[1]*r[0]+q[2]*r[1] for q in c];M=np.array([[m[0],m[1]],[m[1],m[2]]]);dM=[np.array([[c[0][k],c[1][k]],[c[1][k],c[2][k]]]) for k in(1,2)]
        F=t@M@t;Mt=M@t; pt=2*Mt/n-F*t/n**3; g=np.array([t@D@t/n for D in dM])
        rt=np.stack([2*D@t/n-(t@D@t)*t/n**3 for D in dM])
        return P*F/n,[P*g,P*pt,z],{'rt':P*rt,'tt':P*(2*M/n-2*(np.outer(Mt,t)+np.outer(t,Mt))/n**3-F*I2/n**3+3*F*np.outer(t,t)/n**5)}
    if kind in('bound_inv2','bound_log'):
        R,X,Y=p['R'],p['X'],p['Y'];ds=[(r[0],np.array([1.,0])),(X-r[0],np.array([-1.,0])),(r[1],np.array([0,1.])),(Y-r[1],np.array([0,-1.]))]
        if kind=='bound_inv2': ds=[min(ds,key=lambda q:q[0])]
        e=0;g=z.copy();h=Z.copy()
        for d,nv in ds:
            if kind=='bound_inv2': b,b1,b2=1/d**2,-2/d**3,6/d**4
            else:
                dh=p['dhat']
                if d>=dh: continue
                l=np.log(d/dh);q=d-dh; b=-q*q*l/dh**2;b1=(-2*q*l-q*q/d)/dh**2;b2=(-2*l-4*q/d+q*q/d**2)/dh**2
            e+=b;g=g+b1*nv;h=h+b2*np.outer(nv,nv)
        return R*e*n,[R*n*g,R*e*u,z],{'rr':R*n*h,'rt':R*np.outer(g,u),'tt':R*e*Pn}
    raise KeyError(kind)
def energy(kind,q,p,ng,order=2):
    q=np.asarray(q,float);N=q.size;E=0.;G=np.zeros(N);H=np.zeros((N,N));s,w=gauss(ng)
    for m in range(len(q)-1):
        x=np.concatenate([q[m],q[m+1]]).reshape(4,2);ix=np.arange(8)+4*m
        if kind=='strain_seg': e,g,h=energy('length',q[m:m+2],p,ng);S,L0=p['S'],p['L0'];E+=S*(e-L0)**2*e/L0**2;d1=S*(e-L0)*(3*e-L0)/L0**2;d2=S*(6*e-4*L0)/L0**2;G[ix]+=d1*g;H[np.ix_(ix,ix)]+=d1*h+d2*np.outer(g,g);continue
        for si,wi in zip(s,w):
            b=dict(zip('rta',basis(si)));f,g,h=psi(kind,p,b['r']@x,b['t']@x,b['a']@x);E+=wi*f
            G[ix]+=wi*sum(np.outer(b[k],gk) for k,gk in zip('rta',g)).ravel()
            hh=np.zeros((4,2,4,2))
            for key,M in h.items():
                hh+=np.einsum('k,l,ij->kilj',b[key[0]],b[key[1]],M)
                if key[0]!=key[1]: hh+=np.einsum('k,l,ij->kilj',b[key[1]],b[key[0]],M.T)
            H[np.ix_(ix,ix)]+=wi*hh.reshape(8,8)
    if kind=='length' or kind!='strain_text': return E,G,H
def strain_text(q,p,ng):
    e,g,h=energy('length',q,p,ng);S,L0=p['S'],p['L0'];d1=S*(e-L0)*(3*e-L0)/L0**2;return S*(e-L0)**2*e/L0**2,d1*g,d1*h+S*(6*e-4*L0)/L0**2*np.outer(g,g)
def pair_g(kind,p,d2):
    """value, d/d(d2), d2/d(d2)^2"""
    if kind=='inv': return d2**-.5,-.5*d2**-1.5,.75*d2**-2.5
    if kind=='soft': z=d2+p['eps']**2; return z**-.5,-.5*z**-1.5,.75*z**-2.5
    if kind=='tri':
        u=1-d2/p['R']**2
        return (u**3,-3*u*u/p['R']**2,6*u/p['R']**4) if u>0 else (0.,0.,0.)
    if kind=='wca':
        if d2>=p['R']**2: return 0.,0.,0.
        s=p['R']**6/2; return s*s/d2**6-s/d2**3+.25,-6*s*s/d2**7+3*s/d2**4,42*s*s/d2**8-12*s/d2**5
def pair(kind,qa,qb,p,ng):
    qa,qb=np.asarray(qa,float),np.asarray(qb,float);na=qa.size;n=na+qb.size;E=0.;G=np.zeros(n);H=np.zeros((n,n));s,w=gauss(ng)
    def P(q,off):
        o=[]
        for m in range(len(q)-1):
            x=np.concatenate([q[m],q[m+1]]).reshape(4,2)
            for si,wi in zip(s,w): N,dN,_=basis(si);t=dN@x;o.append((wi,N,dN,N@x,t,np.hypot(*t),np.arange(8)+off+4*m))
        return o
    for wa,Na,da,ra,ta,la,ia in P(qa,0):
        for wb,Nb,db,rb,tb,lb,ib in P(qb,na):
            de=ra-rb;d2=de@de;g,g1,g2=pair_g(kind,p,d2);c=p['C']*wa*wb;ua,ub=ta/la,tb/lb;E+=c*g*la*lb
            ga=2*g1*la*lb*de; G[ia]+=c*(np.outer(Na,ga)+np.outer(da,g*lb*ua)).ravel(); G[ib]+=c*(-np.outer(Nb,ga)+np.outer(db,g*la*ub)).ravel()
            K=la*lb*(2*g1*I2+4*g2*np.outer(de,de)); o=lambda k,l,M:np.einsum('k,l,ij->kilj',k,l,M).reshape(8,8)
            haa=o(Na,Na,K)+o(Na,da,2*g1*lb*np.outer(de,ua))+o(da,Na,2*g1*lb*np.outer(ua,de))+o(da,da,g*lb*(I2-np.outer(ua,ua))/la)
            hbb=o(Nb,Nb,K)-o(Nb,db,2*g1*la*np.outer(de,ub))-o(db,Nb,2*g1*la*np.outer(ub,de))+o(db,db,g*la*(I2-np.outer(ub,ub))/lb)
            hab=-o(Na,Nb,K)+o(Na,db,2*g1*la*np.outer(de,ub))-o(da,Nb,2*g1*lb*np.outer(ua,de))+o(da,db,g*np.outer(ua,ub))
            H[np.ix_(ia,ia)]+=c*haa;H[np.ix_(ib,ib)]+=c*hbb;H[np.ix_(ia,ib)]+=c*hab;H[np.ix_(ib,ia)]+=c*hab.T
    return E,G,H
def tone(q,p,ng):
    q=np.asarray(q,float);n=q.size;s,w=gauss(ng);pr=np.array(p['probes'],float);rho=np.zeros(len(pr));J=np.zeros((len(pr),n))
    for m in range(len(q)-1):
        x=np.concatenate([q[m],q[m+1]]).reshape(4,2);ix=np.arange(8)+4*m
        for k,(si,wi) in enumerate(zip(s,w)):
            N,dN,_=basis(si);r=N@x;t=dN@x;l=np.hypot(*t);u=t/l
            ends=(m==0 and k==0)+(m==len(q)-2 and k==ng-1); ink=wi*l+ends*np.pi/8*p['w'] # half a disc beyond each end
            for c in range(len(pr)):
                de=r-pr[c,:2];R2=pr[c,3]**2;z=1-de@de/R2
                if z<=0: continue
                k0=4/(np.pi*R2)*p['w'];rho[c]+=k0*ink*z**3
                J[c,ix]+=(np.outer(N,-6*k0*ink*z*z/R2*de)+np.outer(dN,k0*wi*z**3*u)).ravel()
    f=p['K']*pr[:,5]*pr[:,2]; e=rho-pr[:,4]; return .5*(f*e*e).sum(),J.T@(f*e),J.T@(f[:,None]*J)  # last: Gauss-Newton Hessian

# What follows builds the drawing of tests/test_spline_terms.c and prints the header.
X,Y,L0,pen,ng=1.25,0.8,0.3,0.22,4
def stroke(first,n):
    k=np.arange(first,first+n)
    return np.stack([0.35+0.17*k%0.5+0.02*np.cos(3*k),0.3+0.04*k%0.25+0.05*np.sin(2*k),0.07+0.02*np.cos(k),0.05*np.sin(1.3*k)],1)
SA,SB=stroke(0,3),stroke(3,2)
n=20; b=np.cos(1.7*np.arange(n))
def whole_hull(kind,p): # the four control points, with r' at thirds
    global basis,gauss; old=basis,gauss
    hull=np.array([[1,0,0,0],[1,1,0,0],[0,0,1,-1],[0,0,1,0]],float)
    gauss=lambda _:(np.arange(4)/3,np.full(4,.25)); basis=lambda s:(hull[int(round(3*s))],)+old[0](s)[1:]
    r=whole(kind,p); basis,gauss=old; return r
def whole(kind,p):
    E=0;G=np.zeros(n);H=np.zeros((n,n))
    for q,o in((SA,0),(SB,12)):
        e,g,h=energy(kind,q,p,ng); m=q.size; E+=e;G[o:o+m]+=g;H[o:o+m,o:o+m]+=h
    return E,G,H
old_g=pair_g
def pair_g(kind,p,d2):
    if kind!='wendland': return old_g(kind,p,d2)
    R=p['R'];d=np.sqrt(d2)
    if d>=R: return 0.,0.,0.
    z=1-d/R; return z**4*(4*d/R+1),-10/R**2*z**3,(15/(R**3*d)*z*z if d>0 else 0.)
def pairs(kind,p):
    e,G,H=pair(kind,SA,SB,p,ng); E=e
    for q,o in((SA,0),(SB,12)):
        m=q.size; e,g,h=pair(kind,q,q,p,ng); s=slice(o,o+m)
        E+=e/2; G[s]+=(g[:m]+g[m:])/2; H[s,s]+=(h[:m,:m]+h[m:,m:]+h[:m,m:]+h[m:,:m])/2
    return E,G,H
def two_tone():
    pr=[]
    for j in range(7):
        for i in range(10):
            if (i+j)%2==0: pr.append([(i+.5)*.125,(j+.5)*.8/7,.1/7,.2+.02*((3*i+j)%4),.1+.05*(i*j%5),1+.2*((i+j)%3)]);continue
            for k in range(4):
                I,J=2*i+k%2,2*j+k//2; pr.append([(I+.5)*.0625,(J+.5)*.4/7,.1/28,.11+.01*((I+2*J)%3),.1+.05*(I*J%5),1+.2*((I+J)%3)])
    # two strokes: the ink of both at each probe
    p={'K':3.,'w':pen,'probes':pr}
    rho=np.zeros(len(pr));J=np.zeros((len(pr),n))
    for st,o in((SA,0),(SB,12)):
        p1=dict(p,K=1.)
        for c in range(len(pr)):
            pc=dict(p1,probes=[[pr[c][0],pr[c][1],1.,pr[c][3],0.,1.]])
            e,g,h=tone(st,pc,ng); r=np.sqrt(2*e); rho[c]+=r
            if r>0: J[c,o:o+st.size]+=g/r
    pr=np.array(pr); f=3.*pr[:,5]*pr[:,2]; d=rho-pr[:,4]
    return .5*(f*d*d).sum(),J.T@(f*d),J.T@(f[:,None]*J)
M=[[.9,.3,-.2],[.2,-.4,.3],[.7,-.1,.5]]; phi=[.4,.8,-.6,1.1,-.7,.9]; v=[.3,.5,-.8,-.2,.9,.4]
rows=[('strain',whole('strain_point',dict(S=2.,L0=L0))),('bend',whole('bend_lin',dict(B=.3,L0=L0))),
('align',whole('tensor',dict(P=1.5,M=M))),('wall',whole_hull('bound_log',dict(R=.7,X=X,Y=Y,dhat=2*pen))),
('stretch',whole('strain_seg',dict(S=2.5,L0=L0))),('curvature',whole('bend_kappa',dict(B=.02))),
('potential',whole('potential',dict(Q=1.3,phi=phi))),('flow',whole('field',dict(P=.6,v=v))),('boundary',whole('bound_inv2',dict(R=.05,X=X,Y=Y))),
('tone',two_tone()),('wendland',pairs('wendland',dict(C=1.7,R=.25))),('triweight',pairs('tri',dict(C=1.7,R=.25)))]
def num(a): return ', '.join('%.16e'%x for x in a)
out='''/* spline_reference.h - energies of two strokes by an independent program in Python (numpy), whose derivatives were verified to
 * 1e-14 with numbers of 40 digits; made with
 *
 *     /usr/bin/python3 tests/spline_reference.py > tests/spline_reference.h
 *
 * The strokes, fields and weights are those of tests/test_spline_terms.c. */
#pragma once
/* clang-format off */

typedef struct SplineReference {
    const char *name;
    double energy, gradient[20], product[20]; /* product: Hessian times (cos(1.7 i)) */
} SplineReference;

static const SplineReference spline_reference[] = {
'''
for name,(E,G,H) in rows: out+='    {"%s", %.16e,\n     {%s},\n     {%s}},\n'%(name,E,num(G),num(H@b))
out+='};\n'
print(out,end='')
